"""What the JSON of every command is made of, and its JSON Schema."""
