"""Sentences that follow from the numbers."""
