"""Best possible accuracy from the data, and the error of an estimate against the truth.

model         image points of a box or a disc, float64, independent of the library
bound         Cramer-Rao bound
offline       maximum likelihood fit of all images at once
prism         sides of an upright bounding box, float64, independent of the library
prism_filter  the library's estimator of it in another form
side_memory   its rows, and its memory of the sides' errors
altimeter     its height
scatter       its judgement of the residuals
prism_bound   its Cramer-Rao bound
prism_offline its maximum likelihood fit
judge         error of an estimate against the truth
coverage      share of the answers within two sigma of the truth
"""
