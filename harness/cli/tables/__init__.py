"""What the commands show: tables and equations, in colour on a terminal and plain elsewhere."""
