"""The paper's method: every slice bridged by two balloons, the slices stacked into a patch."""
