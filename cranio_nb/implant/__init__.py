"""What the maker of an implant asks of a patch: its mass, a direction to insert it, a clearance."""
