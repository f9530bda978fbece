"""The report: how early, how certain, how many collisions; all goals; the paper's campaign. HTML pages and plain text.

data         reads the folder of goe_campaign
columns      reads a CSV file by columns
goals_file   reads the file of the goals command
avoid_file   reads the file of goe_avoid
statistics   ranges, verdicts, comparisons of studies
refined      the same for the default method
boxes        upright boxes by roll amplitude
rare         rare events for the page
rare_record  the events, their counts, the file that contains them
rare_command the command rare: many flights in many processes; continues a record
attack_lines names of the lines and figures of hostile flights
attacks      hostile flights of the goals: where the sigma holds, and where not
avoid        the flight layer's orders: collisions with and without them
style        colors, sizes, names
prose        sentences computed from the numbers
figures      the figures of all pages
answers      content of the first page
goals_page   content of the page with all goals
paper_page   content of the page on the paper's campaign
page         renders and writes the pages and the figures
pages        templates and style of the pages
summary      a few lines of plain text
terminal     Table 3 as plain text
paper_table3 the paper's Table 3
command      the command report
"""
