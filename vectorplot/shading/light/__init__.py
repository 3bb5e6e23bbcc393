"""How light falls on faces, and which colours that makes."""
