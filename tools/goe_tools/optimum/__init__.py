"""What the data allow, and how near an estimator comes to it.

flights       flights past obstacles as arrays: simulated, recorded, or any log folder with truth
model         where the points of a box or a disc lie in the images, float64, independent of the library
bound         Cramer-Rao bound
offline       maximum likelihood fit of all images at once
prism         where the sides of an upright box lie, float64, independent of the library
prism_filter  ... the library's estimator of it, in another form
prism_bound   ... Cramer-Rao bound
prism_offline ... maximum likelihood fit
library       the C library over whole tracks
judge         how far an estimate is from the truth
precision     the library in float32 against itself in float64
rivals        other people's methods
paper_table3  the paper's Table 3
goals         every figure that the project promises, beside the figure that is reached
"""
