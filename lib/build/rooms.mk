# The rooms of lib in the order in which data passes through them. A room uses only the rooms before it; tests/check/rooms
# checks this. Firmware: `make library` needs nothing but a C compiler.
LIBRARY_ROOMS := math grasp batch motion cell align sim
# It uses libccd, and exists in double only.
COLLISION_ROOM := collision
HOST_ROOMS := text flow script layout bodies reading record estimate trial mcs survey link host log view study report print app
