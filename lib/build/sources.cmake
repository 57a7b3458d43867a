# The sources and flags of the library, for lib/CMakeLists.txt and lib/zephyr: rooms and flags stand in the make files.
# Sets waferhand_lib, waferhand_sources and waferhand_flags.
get_filename_component(waferhand_lib "${CMAKE_CURRENT_LIST_DIR}" DIRECTORY)
file(STRINGS "${waferhand_lib}/build/rooms.mk" waferhand_rooms REGEX "^LIBRARY_ROOMS := ")
string(REGEX REPLACE "^LIBRARY_ROOMS := " "" waferhand_rooms "${waferhand_rooms}")
file(STRINGS "${waferhand_lib}/build/build.mk" waferhand_flags REGEX "^SAME_BITS := ")
string(REGEX REPLACE "^SAME_BITS := " "" waferhand_flags "${waferhand_flags}")
separate_arguments(waferhand_rooms)
separate_arguments(waferhand_flags)
if(NOT waferhand_rooms OR NOT waferhand_flags)
    message(FATAL_ERROR "lib/build/rooms.mk and build.mk do not say the rooms of the library and their flags")
endif()
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${waferhand_lib}/build/rooms.mk" "${waferhand_lib}/build/build.mk")

set(waferhand_sources)
foreach(room IN LISTS waferhand_rooms)
    file(GLOB own CONFIGURE_DEPENDS "${waferhand_lib}/${room}/*.c")
    list(APPEND waferhand_sources ${own})
endforeach()
