"""What tests of several rooms share: scenes, oracles of rays, readers of what was written."""
