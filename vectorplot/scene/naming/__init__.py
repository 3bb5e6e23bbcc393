"""Names of places in a picture, and where these places are."""
