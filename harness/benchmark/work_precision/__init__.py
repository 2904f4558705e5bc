"""What accuracy costs in time: one motion by many methods, each measured against one reference."""
