"""Views of one log: a page with a map and a time slider, and one moment as a picture.

motion    the aircraft's motion, image by image: path, velocity, direction of the camera
answers   the library's estimates of each obstacle, and goe_hazard's answers for the present velocity
outline   the outline of an estimate, and its two-sigma region
truth     the correct value of each answer
words     one image's answer as sentences
story     all of it in the axes of the map, thinned to the capacity of a page
charts    the charts over time, for page and picture
page      the page: page.html.j2, page.css, page.js and plotly.js in one file
picture   the picture: PNG, or SVG that follows the reader's light or dark theme
command   the command line
"""
