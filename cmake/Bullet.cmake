# Finds Bullet: the targets broadmark::bullet_collision and broadmark::bullet_dynamics. Installed,
# because programs that link the algorithms also link Bullet's collision library.
#
# CMake's FindBullet only sets variables. Debian's libraries are single precision and need no
# definitions.
find_package(Bullet REQUIRED)

# broadmark_bullet(name library uses...)
function(broadmark_bullet name library)
  if(NOT TARGET broadmark::${name})
    add_library(broadmark::${name} UNKNOWN IMPORTED GLOBAL)
    set_target_properties(broadmark::${name} PROPERTIES IMPORTED_LOCATION "${library}"
      INTERFACE_INCLUDE_DIRECTORIES "${BULLET_INCLUDE_DIRS}" INTERFACE_LINK_LIBRARIES "${ARGN}")
  endif()
endfunction()
broadmark_bullet(bullet_math "${BULLET_MATH_LIBRARY}")
broadmark_bullet(bullet_collision "${BULLET_COLLISION_LIBRARY}" broadmark::bullet_math)
broadmark_bullet(bullet_dynamics "${BULLET_DYNAMICS_LIBRARY}" broadmark::bullet_collision)
