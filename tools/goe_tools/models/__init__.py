"""What the data allow, and how far an estimate is from the truth.

model         where the points of a box or a disc lie in the images, float64, independent of the library
bound         Cramer-Rao bound
offline       maximum likelihood fit of all images at once
prism         where the sides of an upright box lie, float64, independent of the library
prism_filter  ... the library's estimator of it, in another form
prism_bound   ... Cramer-Rao bound
prism_offline ... maximum likelihood fit
judge         how far an estimate is from the truth
coverage      how often the truth lies within two sigma
"""
