"""The machines and the tasks set on them: one folder an exercise, each with statement, program, plant and picture."""
