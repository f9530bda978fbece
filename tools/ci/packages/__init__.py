"""Packages for other people's package managers, every manifest from one place.

facts    version, parts, files, words: read from lib/goe.h, LICENSE and the folders
staging  templates and copies: how a folder is filled
targets  what each package manager gets
command  the command: python -m ci packages

Templates (.j2) and READMEs lie in the folder of their host, port/<host>/.
"""
