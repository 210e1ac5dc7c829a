"""What intact skulls let one predict: learn a prior, keep it in a file, predict the bone around an opening."""
