"""Rounds of a sweep: which values and seeds run next is decided from the rows that are there."""
