"""What goes over the serial ports: Modbus frames and the slave (chapter 10)."""
