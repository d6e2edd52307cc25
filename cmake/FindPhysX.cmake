# Finds NVIDIA's PhysX SDK, built as static libraries: the target PhysX::PhysX. It has no
# CMake package file; its install step sorts libraries by platform and build type.
find_path(PhysX_INCLUDE_DIR PxPhysicsAPI.h PATH_SUFFIXES include physx)
set(PhysX_LIBRARIES "")
foreach(name IN ITEMS PhysXExtensions PhysX PhysXPvdSDK PhysXCooking PhysXCommon PhysXFoundation)
  find_library(PhysX_${name}_LIBRARY ${name}_static_64
    PATH_SUFFIXES bin/linux.x86_64/release bin/linux.clang/release bin/linux.aarch64/release)
  list(APPEND PhysX_LIBRARIES ${PhysX_${name}_LIBRARY})
  list(APPEND needed PhysX_${name}_LIBRARY)
endforeach()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(PhysX REQUIRED_VARS PhysX_INCLUDE_DIR ${needed})

if(PhysX_FOUND AND NOT TARGET PhysX::PhysX)
  find_package(Threads REQUIRED)
  add_library(PhysX::PhysX INTERFACE IMPORTED)
  target_include_directories(PhysX::PhysX INTERFACE ${PhysX_INCLUDE_DIR})
  # Its headers require one of the two.
  target_compile_definitions(PhysX::PhysX INTERFACE PX_PHYSX_STATIC_LIB
    $<IF:$<CONFIG:Debug>,_DEBUG,NDEBUG>)
  target_link_libraries(PhysX::PhysX INTERFACE ${PhysX_LIBRARIES} Threads::Threads ${CMAKE_DL_LIBS})
endif()
