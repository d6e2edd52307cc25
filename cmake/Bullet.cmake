# Finds Bullet: the targets broadmark::bullet_collision and broadmark::bullet_dynamics. Installed
# too, as whoever links the algorithms links Bullet's collision library.
#
# CMake's FindBullet gives variables only. Debian's main libraries are single precision and need no
# definitions. The order is the linker's: each library before those it uses.
find_package(Bullet REQUIRED)

if(NOT TARGET broadmark::bullet_collision)
  add_library(broadmark::bullet_collision INTERFACE IMPORTED GLOBAL)
  target_include_directories(broadmark::bullet_collision SYSTEM INTERFACE ${BULLET_INCLUDE_DIRS})
  target_link_libraries(broadmark::bullet_collision INTERFACE
    ${BULLET_COLLISION_LIBRARY} ${BULLET_MATH_LIBRARY})

  add_library(broadmark::bullet_dynamics INTERFACE IMPORTED GLOBAL)
  target_link_libraries(broadmark::bullet_dynamics INTERFACE
    ${BULLET_DYNAMICS_LIBRARY} broadmark::bullet_collision)
endif()
