"""Screens as the sources have them: a framebuffer, a device, what a depth buffer answers, faces that erase."""
