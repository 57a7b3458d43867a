# The rooms of lib in the order in which data passes through them. A room uses only the rooms before it; tests/check/rooms
# checks this. Firmware: `make library` needs nothing but a C compiler.
LIBRARY_ROOMS := math grasp batch motion cell align sim
# It uses libccd, and exists in double only.
COLLISION_ROOM := collision
HOST_ROOMS := text flow script schedule layout bodies reading record trial mcs survey scene wire link log host loop view study estimate report print play app
# Java, beside them: it uses the messages alone.
SPY_ROOM := spy
# The engine and the page of the playground, beside them: the program has neither.
PLAYGROUND_ROOM := playground
