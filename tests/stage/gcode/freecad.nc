(Exported by a CAM workbench)
(Post Processor: a linuxcnc style)
(Begin preamble)
G17 G54 G40 G49 G80 G90
G21
(Begin operation: TC: 3mm endmill)
M05
M6 T2
G43 H2
M3 S8000
(Begin operation: Profile)
G0 Z5.000
G0 X30.000 Y40.000
G0 Z3.000
G1 X30.000 Y40.000 Z-1.500 F90.000
G2 I20.000 J0.000 K0.000 X70.000 Y40.000 Z-1.500 F450.000
G2 I-20.000 J0.000 K0.000 X30.000 Y40.000 Z-1.500
G0 Z5.000
(Begin operation: Drilling)
G98
G81 X50.000 Y40.000 Z-3.000 R1.000 F60.000
X90.000
Y80.000
G80
G0 Z5.000
(Begin postamble)
M05
G17 G54 G90 G80 G40
M2
