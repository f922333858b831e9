"""Where a platform can be: grids of poses judged by its limits, and the singular ones among them."""
