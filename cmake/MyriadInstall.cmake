# SPDX-License-Identifier: MIT
# The install targets, by components, and the Debian package.
include(CMakePackageConfigHelpers)
set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/myriad")

# myriad_install_component(<component> <target> <headers>... [EXCEPT <pattern>...])
function(myriad_install_component component target)
    cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "EXCEPT")
    set(except)
    foreach(pattern IN LISTS arg_EXCEPT)
        list(APPEND except PATTERN ${pattern} EXCLUDE)
    endforeach()
    install(TARGETS ${target} EXPORT myriad_${component} ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}"
                                                                 COMPONENT ${component})
    install(DIRECTORY ${arg_UNPARSED_ARGUMENTS} DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT ${component}
            FILES_MATCHING PATTERN "*.hpp" PATTERN "*.cuh" ${except})
    install(EXPORT myriad_${component} NAMESPACE myriad:: DESTINATION "${package_dir}" COMPONENT ${component}
            FILE myriad-${component}.cmake)
endfunction()

myriad_install_component(core myriad include/myriad EXCEPT study* program.hpp)
myriad_install_component(openmp myriad_openmp backends/openmp/myriad)
if(MYRIAD_BUILD_STUDY)
    install(TARGETS myriad_study EXPORT myriad_study ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT study)
    install(FILES include/myriad/study.hpp DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/myriad" COMPONENT study)
    install(DIRECTORY include/myriad/study DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/myriad" COMPONENT study)
    install(EXPORT myriad_study NAMESPACE myriad:: DESTINATION "${package_dir}" COMPONENT study
            FILE myriad-study.cmake)
    install(FILES cmake/MyriadNetcdf.cmake DESTINATION "${package_dir}" COMPONENT study)
endif()
if(TARGET myriad_program)
    install(TARGETS myriad_program EXPORT myriad_study ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT study)
    install(TARGETS myriad_command RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT study)
    install(FILES include/myriad/program.hpp DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/myriad" COMPONENT study)
    install(FILES "${PROJECT_BINARY_DIR}/installed_model_flags.txt" DESTINATION "${myriad_data_dir}"
            RENAME model_flags.txt COMPONENT study)
    install(FILES ${myriad_plot_scripts} DESTINATION "${myriad_data_dir}" COMPONENT study)
endif()
if(MYRIAD_ENABLE_CUDA)
    myriad_install_component(cuda myriad_cuda backends/cuda/myriad)
    install(FILES cmake/MyriadCuda.cmake DESTINATION "${package_dir}" COMPONENT cuda)
endif()

configure_package_config_file(cmake/myriadConfig.cmake.in myriadConfig.cmake INSTALL_DESTINATION "${package_dir}")
write_basic_package_version_file(myriadConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/myriadConfig.cmake" "${PROJECT_BINARY_DIR}/myriadConfigVersion.cmake"
              cmake/MyriadModels.cmake cmake/MyriadXsimd.cmake
        DESTINATION "${package_dir}" COMPONENT core)
install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/myriad" COMPONENT core)

# cpack -G DEB makes one package of all components. Dependencies are what programs are compiled with.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME myriad)
set(CPACK_PACKAGE_VENDOR "The Myriad developers")
set(CPACK_PACKAGE_CONTACT "The Myriad developers <myriad@example.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_PACKAGE_NAME libmyriad-dev)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4), libxsimd-dev (>= 8.1)")
if(MYRIAD_BUILD_STUDY)
    string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS ", libnetcdf-dev")
endif()
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "g++ (>= 4:12), cmake (>= 3.25)")
if(TARGET myriad_program)
    set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
    string(APPEND CPACK_DEBIAN_PACKAGE_RECOMMENDS ", python3-matplotlib, python3-netcdf4")
endif()
include(CPack)
