"""What intact skulls let one predict of the bone in a hole."""
