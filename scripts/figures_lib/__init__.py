"""What scripts/figures is made of: renders kept by their settings, measurements, one module a figure, the page."""
