"""Fits the line tension and the near-wall drag of a droplet to measured passages through a channel, or along a wall."""
