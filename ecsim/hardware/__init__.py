"""What works beside the program: each unit moves with simulated time."""
