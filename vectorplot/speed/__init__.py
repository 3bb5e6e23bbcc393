"""What pictures cost: fixed scenes beside bare costs of the same run, how that grows, and logs of it to compare."""
