"""The compiled loops: numbers in, numbers out. Nothing here knows a class of the package."""
