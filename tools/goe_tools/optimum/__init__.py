"""What the data allow, and how near an estimator comes to it.

flights    flights past obstacles as arrays: simulated, recorded, or any log folder with truth
model      where the points of a box or a disc lie in the images, float64, independent of the library
bound      Cramer-Rao bound
offline    maximum likelihood fit of all images at once
library    the C library over whole tracks
goals      every figure that the project promises, beside the figure that is reached
"""
