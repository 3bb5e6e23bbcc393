"""The curves of a scene, before it is known what hides them."""
