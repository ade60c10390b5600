/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a kinematics module uses of LinuxCNC, with its names (man 9 kins): enough to load one without it. */
#ifndef CHAINTRUE_STUB_KINEMATICS_H
#define CHAINTRUE_STUB_KINEMATICS_H
typedef struct { double x, y, z; } PmCartesian;
typedef struct { PmCartesian tran; double a, b, c, u, v, w; } EmcPose;
typedef unsigned long KINEMATICS_FORWARD_FLAGS;
typedef unsigned long KINEMATICS_INVERSE_FLAGS;
typedef enum { KINEMATICS_IDENTITY = 1, KINEMATICS_FORWARD_ONLY, KINEMATICS_INVERSE_ONLY, KINEMATICS_BOTH } KINEMATICS_TYPE;
#define KINS_NOT_SWITCHABLE int kinematicsSwitchable(void) { return 0; }
#endif
