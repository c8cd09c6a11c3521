"""Colour model, segmentation, blob, box and edges: from a YUYV picture to an outline."""
