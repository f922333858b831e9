"""The rows of a comparison, arranged for statistics, and the tests that compare methods."""
