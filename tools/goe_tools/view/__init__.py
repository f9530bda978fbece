"""One log as a page with a map and a slider over time, and as a picture.

motion    the aircraft's motion, image by image: path, velocity, direction of the camera
answers   the library's estimate of each obstacle, and the hazard on the present course
outline   the outline of an estimate and its 2-sigma region
truth     the true value of each quantity
words     one image's estimate as sentences
story     all of it in the axes of the map, with fewer images if there are too many for a page
charts    the charts over time, for page and picture
page      the page: page.html.j2, page.css, page.js and plotly.js in one file
picture   the picture: PNG, or SVG that follows the reader's color scheme
command   the command line
"""
