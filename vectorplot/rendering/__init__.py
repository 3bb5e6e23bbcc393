"""The stages of the verb render: its shadows, its pixels, and the lines and letters over them."""
