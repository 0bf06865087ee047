# find_package(lbm_engine) -> lbm::engine, for projects outside this one.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/lbm_engine)
configure_package_config_file(
    cmake/lbm_engine-config.cmake.in ${PROJECT_BINARY_DIR}/lbm_engine-config.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lbm_engine-config-version.cmake COMPATIBILITY SameMinorVersion)

install(EXPORT lbm_engine_targets NAMESPACE lbm:: FILE lbm_engine-targets.cmake DESTINATION ${package_dir})
install(
    FILES ${PROJECT_BINARY_DIR}/lbm_engine-config.cmake ${PROJECT_BINARY_DIR}/lbm_engine-config-version.cmake
    DESTINATION ${package_dir})
