"""The motion of a scene in numbers: engines, what keeps the constraints, what came of it."""
