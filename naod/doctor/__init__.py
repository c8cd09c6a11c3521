"""What `naod doctor` looks at: one room for each thing that can be wrong."""
