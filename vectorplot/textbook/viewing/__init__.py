"""Viewing step by step: homogeneous points, frames of cameras, the matrices to pixels, the frustum."""
