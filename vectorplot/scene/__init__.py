"""What stands in a picture, and the picture as one camera sees it."""
