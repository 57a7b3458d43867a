# The rooms of lib in the order in which data passes through them. A room uses only the rooms before it; tests/check/rooms
# checks this. Firmware: `make library` needs nothing but a C compiler.
LIBRARY_ROOMS := math grasp batch motion cell align sim
# It uses libccd, and exists in double only.
COLLISION_ROOM := collision
HOST_ROOMS := text flow script schedule layout bodies reading record trial mcs survey wire link log host loop view study estimate report print app
# Java, beside them: it uses the messages alone.
SPY_ROOM := spy
