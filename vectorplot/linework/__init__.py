"""The stages of the verb draw: the lines of a scene, what is seen of them, their labels and layers."""
