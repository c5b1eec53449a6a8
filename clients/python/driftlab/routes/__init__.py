"""The routes of the contract, one file per group of resources: a method per operation, nothing more clever than that."""
