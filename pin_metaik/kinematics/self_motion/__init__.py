"""Self-motion: how the joints of a chain with one spare degree of freedom move while its frame keeps to its target."""
