"""Line tension and near-wall drag of a droplet from measured passages through a channel, or along a wall."""
