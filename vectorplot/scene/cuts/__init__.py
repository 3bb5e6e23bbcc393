"""Cuts that a scene asks for, and how they are spelled; scenes whose parts are moved apart."""
