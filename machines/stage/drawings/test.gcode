; The stage's test path: rectangle, diagonal, circle.
G21 G90 G17
G0 X20 Y20
G1 X100 F600        ; rectangle
Y80
X20
Y20
X100 Y80            ; diagonal
G0 X80 Y50
G3 I-20 J0          ; circle about (60, 50)
G0 X20 Y20
M30
