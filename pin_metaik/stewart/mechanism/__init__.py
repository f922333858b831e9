"""A mechanism with everything that is asked about it: what a file keeps."""
