"""What is seen through refracting bodies."""
