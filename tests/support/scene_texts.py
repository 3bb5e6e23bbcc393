"""Texts of scenes that several tests read."""

PYRAMID = """PYRAMID metallic gray convex hollow
vertices
  2 0 0 , 1 2 0 , -1 2 0 , -2 0 0 , -1 -2 0 , 1 -2 0 ,
  2 0 4 , 1 2 1 , -1 2 1 , -2 0 4 , -1 -2 1 , 1 -2 1
edges
  1 2 , 2 3 , 3 4 , 4 5 , 5 6 , 6 1 ,
  7 8 , 8 9 , 9 10 , 10 11 , 11 12 , 12 7 ,
  1 7 , 2 8 , 3 9 , 4 10 , 5 11 , 6 12 , 7 10
faces
  1 2 3 4 5 6 ,
  1 2 8 7 , 2 3 9 8 , 3 4 10 9 , 4 5 11 10 ,
  5 6 12 11 , 6 1 7 12 , 10 11 12 7
"""
