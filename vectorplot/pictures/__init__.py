"""The verbs, and the stages that a picture is made in."""
