"""Which of two faces or bodies is painted first."""
