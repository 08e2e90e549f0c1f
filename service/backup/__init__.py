"""Backups: a whole library as one file, and back.

The file is a tar that ordinary tools read, of plain files in this order:

    library.json          what made it: format, versions, counts
    files/KEY             every file that belongs to a shape, under its key in the file store
    tables/NAME.jsonl     every table of the catalogue, a row a line
    SHA256SUMS            of all of these, for `sha256sum -c`; without it the file was cut
"""
