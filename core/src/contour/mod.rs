//! Contours traced from masks: in a grid of pixels, out closed polygons.
