# SPDX-License-Identifier: MIT
# The command-line program. myriad::program is the function main and all commands, for programs with models of their
# own; the program `myriad` compiles models when it runs, for which it has all functions of the library and knows where
# the headers are.

file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/program/*.cpp")
list(REMOVE_ITEM sources "${PROJECT_SOURCE_DIR}/src/program/threads.cpp")
add_library(myriad_program STATIC ${sources})
myriad_add_compile_sources(myriad_program)
add_library(myriad::program ALIAS myriad_program)
# Compiled together, as the parts of the host side are, but for `main`, which programs may have of their own.
set_property(SOURCE "${PROJECT_SOURCE_DIR}/src/program/main.cpp" PROPERTY SKIP_UNITY_BUILD_INCLUSION ON)
set_target_properties(myriad_program PROPERTIES EXPORT_NAME program UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
target_include_directories(myriad_program PRIVATE "${PROJECT_SOURCE_DIR}/src")
target_include_directories(myriad_program SYSTEM PRIVATE "${MYRIAD_TOMLPLUSPLUS_INCLUDE_DIR}")
# From the program's folder: the same in the build and where it is installed.
set(myriad_data_dir "${CMAKE_INSTALL_DATADIR}/myriad")
file(RELATIVE_PATH relative "/prefix/${CMAKE_INSTALL_BINDIR}" "/prefix/${myriad_data_dir}")
target_compile_definitions(myriad_program PRIVATE "MYRIAD_PROGRAM_DATA=\"${relative}\"")
target_link_libraries(myriad_program PUBLIC myriad_study PRIVATE $<BUILD_INTERFACE:CLI11::CLI11> ${CMAKE_DL_LIBS})
if(NOT PROJECT_IS_TOP_LEVEL)
    target_compile_options(myriad_program PRIVATE -w)
endif()

add_executable(myriad_command src/program/main.cpp src/program/threads.cpp)
set_target_properties(myriad_command PROPERTIES OUTPUT_NAME myriad ENABLE_EXPORTS ON
                      RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_BINDIR}")
target_include_directories(myriad_command PRIVATE "${PROJECT_SOURCE_DIR}/src")
# Compiled models call what the program itself does not.
target_link_options(myriad_command PRIVATE "LINKER:--whole-archive" "$<TARGET_FILE:myriad>"
                    "$<TARGET_FILE:myriad_study>" "LINKER:--no-whole-archive")
target_link_libraries(myriad_command PRIVATE myriad_program myriad_openmp)

# myriad_write_model_flags(<file> <folder>...) writes where the headers of the library, of Eigen and of xsimd are. A
# folder that does not begin with / is from that of the file.
function(myriad_write_model_flags file)
    set(lines ${ARGN})
    foreach(target IN ITEMS Eigen3::Eigen myriad::xsimd)
        get_target_property(folders ${target} INTERFACE_INCLUDE_DIRECTORIES)
        get_target_property(definitions ${target} INTERFACE_COMPILE_DEFINITIONS)
        if(folders)
            list(APPEND lines ${folders})
        endif()
        if(definitions)
            list(TRANSFORM definitions PREPEND "-D")
            list(APPEND lines ${definitions})
        endif()
    endforeach()
    list(REMOVE_DUPLICATES lines)
    list(JOIN lines "\n" text)
    file(CONFIGURE OUTPUT "${file}" CONTENT "${text}\n")
endfunction()
myriad_write_model_flags("${PROJECT_BINARY_DIR}/${myriad_data_dir}/model_flags.txt" "${PROJECT_SOURCE_DIR}/include"
                         "${PROJECT_SOURCE_DIR}/backends/openmp")
file(RELATIVE_PATH relative "/prefix/${myriad_data_dir}" "/prefix/${CMAKE_INSTALL_INCLUDEDIR}")
myriad_write_model_flags("${PROJECT_BINARY_DIR}/installed_model_flags.txt" "${relative}")
# What draws, of which the Python package has the pictures themselves.
set(myriad_plot_scripts "${PROJECT_SOURCE_DIR}/src/program/plot.py" "${PROJECT_SOURCE_DIR}/examples/common/figure.py")
set(myriad_plot_pictures "${PROJECT_SOURCE_DIR}/python/myriad_ode/base/plots.py"
    "${PROJECT_SOURCE_DIR}/python/myriad_ode/base/plot_parts.py"
    "${PROJECT_SOURCE_DIR}/python/myriad_ode/base/errors.py")
foreach(script IN LISTS myriad_plot_scripts myriad_plot_pictures)
    cmake_path(GET script FILENAME name)
    if(script IN_LIST myriad_plot_pictures)
        string(PREPEND name "pictures/")
    endif()
    configure_file("${script}" "${PROJECT_BINARY_DIR}/${myriad_data_dir}/${name}" COPYONLY)
endforeach()
