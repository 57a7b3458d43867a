# The rooms of lib in the order of the data; each uses only the ones before it, which tests/check/rooms sees to.
# Firmware: `make library` needs nothing but a C compiler.
LIBRARY_ROOMS := math grasp batch motion cell align sim
# Over libccd, and in double only.
COLLISION_ROOM := collision
HOST_ROOMS := text script layout record estimate mcs link host log view study report print app
