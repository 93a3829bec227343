"""From the solids of a mechanism to pieces that one prints, cuts and buys (mm).

In this order, a chapter each:

    laying.py  the face that a piece lies on, its turn on the bed, equal pieces, and pieces to cut from a sheet
    plates.py  places on as few plates as it finds, as 3MF and STL; outlines as DXF
    making.py  all of these together, and the lists as Markdown and CSV
"""
