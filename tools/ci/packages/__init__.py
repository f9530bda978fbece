"""Packages for other package managers, with generated manifests.

facts    version, parts, files, texts: from lib/goe.h, LICENSE and the folders
staging  templates and copies that fill a package's folder
targets  content of each package
command  the command: python -m ci packages

Templates (.j2) and READMEs are in the folder of their host, port/<host>/.
"""
