# nbgrader grades the notebooks of this folder: python -m ecsim_exercises.assignments wrote it.
c = get_config()  # noqa: F821 - nbgrader gives it
c.CourseDirectory.course_id = "plc"
# The starter stands outside the region of the solution, so that nothing need stand in its place.
c.ClearSolutions.code_stub = {"python": "# Your program stands between the quotes above."}
# A program is ended by its own limits before that.
c.ExecutePreprocessor.timeout = 300
