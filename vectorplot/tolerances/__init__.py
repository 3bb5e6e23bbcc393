"""The table of tolerances: what counts as zero, as equal, as found or as settled, each with a name and a reason.

All are relative, each file to something else: what they are multiplied with stands where they are used. A small number
anywhere else in the package fails a test. docs/tolerances.md shows the whole table.

Source: Glaeser, sections 1.1 and 3.1 (central constants); errata G1-03, G1-06.
"""
