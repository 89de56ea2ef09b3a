"""Plans the rounds of a sweep: the existing rows determine which values and seeds run next."""
