"""From the solids of a mechanism to what one prints, cuts and buys (mm).

In this order, a file each:

    laying.py       which face a piece lies on, and how it is turned on the bed
    alike.py        pieces that are equal are made several times
    packing.py      places on as few plates as it finds
    plate_files.py  a plate as 3MF and STL
    flat.py         which pieces can be cut from a sheet
    outlines.py     their outlines as DXF
    making.py       all of these together
    lists.py        what is to be made and what is to be bought, as Markdown and CSV
"""
