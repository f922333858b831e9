"""Between poses and legs, both ways: lengths, rates, dexterity, assemblies, trajectories."""
