"""The campaign's report: the paper's results and ours side by side, as one HTML page and as a table for the terminal.

data        what goe_campaign wrote
columns     a CSV file by columns
goals_file  what the goals command wrote
avoid_file  what goe_avoid wrote
statistics  ranges, verdicts, comparisons of studies
refined     the same of the filter method
rare        how often what must not happen does: on the page
rare_record the events, their counts, the file that keeps them
rare_command flies, in many processes, and goes on where a record ends
attack_lines the names of the lines and figures of hostile flights
attacks     hostile flights of the goals: where the sigma holds, and where not
avoid       the flight layer's orders, flown: collisions with and without
style       colours, sizes, names
prose       sentences that follow from the numbers
figures     the paper's figures 5 to 14 and our own
page        the HTML page and the files beside it
terminal    Table 3 as plain text
paper_table3 the paper's Table 3
command     writes the page, prints the table
"""
