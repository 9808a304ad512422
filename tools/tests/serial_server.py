"""A serial server of RFC 2217 by pyserial: SERIAL_PORT; prints its TCP port, serves one client."""

import socket
import sys
import threading

import serial
import serial.rfc2217


class Manager(serial.rfc2217.PortManager):
    def check_modem_lines(self, force_notification=False):
        """A pseudo-terminal has none."""


class Connection:
    def __init__(self, stream):
        self.stream = stream

    def write(self, data):
        self.stream.sendall(data)


def carry_up(port, manager, stream):
    while True:
        data = port.read(max(1, port.in_waiting))
        stream.sendall(b"".join(manager.escape(data)))


def main():
    port = serial.Serial(sys.argv[1])
    listener = socket.create_server(("127.0.0.1", 0))
    print(listener.getsockname()[1], flush=True)
    stream, _ = listener.accept()
    stream.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    manager = Manager(port, Connection(stream))
    threading.Thread(target=carry_up, args=(port, manager, stream), daemon=True).start()
    while data := stream.recv(1024):
        port.write(b"".join(manager.filter(data)))
    print(port.baudrate, port.bytesize, port.parity, port.stopbits, flush=True)


main()
