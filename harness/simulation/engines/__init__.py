"""The engines that follow a motion, behind one protocol."""
