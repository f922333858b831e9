"""Running a comparison, or one of its trials again."""
