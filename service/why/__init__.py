"""Why two shapes lie as far apart as they do: how much each region of each adds to their distance."""
