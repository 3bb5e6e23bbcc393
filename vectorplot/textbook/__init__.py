"""What the sources teach and no verb needs: to learn from, and to build on."""
