"""The fitted curve, as a search needs it."""
