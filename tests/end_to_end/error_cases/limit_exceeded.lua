cell "cell.lua"
move { z = 2000 }
