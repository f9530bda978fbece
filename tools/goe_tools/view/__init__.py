"""One log, seen: a page with a map and a slider over time, and the same as a picture.

motion    the aircraft's own motion, image by image: path, velocity, where the camera looks
answers   what the library says of each obstacle, and what goe_hazard says of flying on
outline   the outline of an estimate, and the region that holds it by two sigma
truth     what each answer would be if it were right
words     one image's answer as sentences
story     all of it in the axes of the map, thinned to what a page can hold
charts    what is drawn over time, for page and picture
page      the page: page.html.j2, page.css, page.js and plotly.js in one file
picture   the picture: PNG, or SVG that follows the reader's light or dark
command   the command line
"""
