"""Refinement of a sweep: decides which values and seeds run next, and runs clogsweep round by round."""
