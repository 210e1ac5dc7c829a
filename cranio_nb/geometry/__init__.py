"""Work on triangle meshes and robust fits that several stages share; knows the nouns only."""
