"""Labels of a scene: which ones a picture shows, their marks, and those that there is room for."""
