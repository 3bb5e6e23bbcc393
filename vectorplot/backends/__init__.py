"""Drawings as files: a backend sees a Drawing and nothing else."""
