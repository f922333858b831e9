"""What the site has that Sphinx has not: extensions, each of one idea. Nothing of it is in the wheel."""
