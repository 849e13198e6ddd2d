#!/bin/sh
# SPDX-License-Identifier: MIT
# mpirun of Open MPI 4 or 5 on one machine, with more ranks than cores, and also as root, as in a container. Usage:
# mpirun.sh ARGUMENT...
export OMPI_MCA_rmaps_base_oversubscribe=1 PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe
if [ "$(id -u)" = 0 ]; then export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1; fi
exec mpirun "$@"
