"""Proofs that a target is out of reach: closed forms on balls, and branch and bound over boxes of configurations."""
