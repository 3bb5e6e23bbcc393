"""What mirrors show, and the light they throw."""
