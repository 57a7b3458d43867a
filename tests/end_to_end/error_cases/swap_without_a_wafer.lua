cell "cell.lua"
swap("A", 1)
