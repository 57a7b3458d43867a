-- So short a stroke begins within the tolerance: the wafer is on the pads as soon as the valve opens.
cell "cell.lua"
get("A", 1, { stroke = 0.6, offset = 0.3 })
