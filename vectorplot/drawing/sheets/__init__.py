"""Sheets of paper with several drawings on them, their frames and title blocks."""
