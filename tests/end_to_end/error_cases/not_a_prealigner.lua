cell "cell.lua"
rotate("A", 90)
