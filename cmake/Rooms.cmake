# The rooms of the house, and which of them each may use. A room sees its own folder and the public
# headers (include/) of the rooms that it links to: any other include does not compile. This checks,
# whenever the build is configured, that no room links to more, that none sees the source root, and
# that no include climbs out of its room.
function(broadmark_check_room room)
  set(target broadmark_${room})
  if(NOT TARGET ${target})  # left out of this build
    return()
  endif()
  get_target_property(libraries ${target} LINK_LIBRARIES)
  foreach(other IN ITEMS engine algorithms scenes render app)
    if("broadmark_${other}" IN_LIST libraries AND NOT other IN_LIST ARGN)
      message(FATAL_ERROR "Room ${room} must not use ${other}: see cmake/Rooms.cmake")
    endif()
  endforeach()
  get_target_property(directories ${target} INCLUDE_DIRECTORIES)
  if(PROJECT_SOURCE_DIR IN_LIST directories)
    message(FATAL_ERROR "Room ${room} must not see the source root")
  endif()
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${room}/*.cpp ${room}/*.h ${room}/*.inl)
  foreach(source IN LISTS sources)
    file(STRINGS ${source} climbing REGEX "#include \"\\.\\./")
    if(climbing)
      message(FATAL_ERROR "${source}: ${climbing}: an include must not climb out of its folder")
    endif()
  endforeach()
endfunction()

broadmark_check_room(engine)
broadmark_check_room(algorithms engine)
broadmark_check_room(scenes engine)
broadmark_check_room(render engine)
broadmark_check_room(app engine algorithms scenes render)
