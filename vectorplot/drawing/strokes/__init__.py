"""From visible pieces to what a pen draws."""
